#pragma once
#pragma GCC system_header
#include <cstdio>
#include <string>
#include "sim/plan/opacity_groups.hpp"
namespace pitviper {
template<class T> void wr(FILE*f,const std::vector<T>&v){ size_t n=v.size(); fwrite(&n,8,1,f); fwrite(v.data(),sizeof(T),n,f);} 
inline void wr2(FILE*f,const std::vector<std::vector<double>>&v){ size_t n=v.size(); fwrite(&n,8,1,f); for(auto&x:v) wr(f,x);} 
inline void dumpProblem(const SpectralProblem&p,double tol,const std::string&name){ FILE*f=fopen(name.c_str(),"wb"); fwrite(&tol,8,1,f); wr(f,p.weight); wr2(f,p.spectra); wr2(f,p.extinction); wr2(f,p.paths); size_t n=p.products.size(); fwrite(&n,8,1,f); for(auto&x:p.products){ fwrite(&x.floor,8,1,f); wr(f,x.terms);} fclose(f);} 
template<class T> std::vector<T> rd(FILE*f){ size_t n; if(fread(&n,8,1,f)!=1) throw 1; std::vector<T> v(n); if(n&&fread(v.data(),sizeof(T),n,f)!=n) throw 1; return v;} 
inline std::vector<std::vector<double>> rd2(FILE*f){ size_t n; if(fread(&n,8,1,f)!=1) throw 1; std::vector<std::vector<double>> v(n); for(auto&x:v) x=rd<double>(f); return v;} 
inline SpectralProblem loadProblem(const std::string&name,double&tol){ FILE*f=fopen(name.c_str(),"rb"); SpectralProblem p; if(fread(&tol,8,1,f)!=1) throw 1; p.weight=rd<double>(f); p.spectra=rd2(f); p.extinction=rd2(f); p.paths=rd2(f); size_t n; if(fread(&n,8,1,f)!=1) throw 1; p.products.resize(n); for(auto&x:p.products){ if(fread(&x.floor,8,1,f)!=1) throw 1; x.terms=rd<ProductTerm>(f);} fclose(f); return p;}
}
